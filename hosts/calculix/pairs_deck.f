!     Reads *CONTACT PAIR, TYPE=STICKSLIP: pairs of surfaces for the library stickslip (pairs.c).
!
!     *CONTACT PAIR, TYPE=STICKSLIP, INTERACTION=NAME [, SMALL SLIDING] [, MODULUS=E]
!     slave surface, master surface                   a line for each pair
!
!     The slave surface has the multipliers. The coefficient of *FRICTION counts, 0 where there is none; its stick slope
!     and *SURFACE BEHAVIOR do not. MODULUS is Young's modulus of the softer body, for materials that have none.
!
!     A pair is a tie of kind K, which no routine of CalculiX looks at.
!     tietol(1,*): -1 with SMALL SLIDING, else 1; tietol(2,*): the interaction; tietol(3,*): MODULUS or 0.
!
      subroutine stickslippairs(textpart,tieset,istep,istat,n,iline,
     &     ipol,inl,ipoinp,inp,ntie,ntie_,iperturb,matname,nmat,
     &     inpc,ipoinpc,tietol,ier)
      implicit none
      character*1 inpc(*)
      character*80 matname(*),material
      character*81 tieset(3,*)
      character*132 textpart(16)
      integer istep,istat,n,i,side,key,iline,ipol,inl,ipoinp(2,*),
     &     inp(3,*),ntie,ntie_,iperturb(*),nmat,ipoinpc(0:*),ier,
     &     status,interaction,first
      real*8 tietol(4,*),modulus,sliding
!
      material=' '
      modulus=0.d0
      sliding=1.d0
      first=ntie
      if(istep.gt.0) then
        write(*,*) '*ERROR reading *CONTACT PAIR, TYPE=STICKSLIP: it'
        write(*,*) '       belongs in front of all steps'
        ier=1
        return
      endif
      do i=2,n
        if(textpart(i)(1:12).eq.'INTERACTION=') then
          material=textpart(i)(13:92)
        elseif(textpart(i)(1:12).eq.'SMALLSLIDING') then
          sliding=-1.d0
        elseif(textpart(i)(1:8).eq.'MODULUS=') then
          read(textpart(i)(9:28),'(f20.0)',iostat=status) modulus
          if((status.ne.0).or.(modulus.le.0.d0)) then
            call inputerror(inpc,ipoinpc,iline,
     &           "*CONTACT PAIR, TYPE=STICKSLIP: MODULUS > 0%",ier)
            return
          endif
        elseif(textpart(i)(1:14).ne.'TYPE=STICKSLIP') then
          call inputerror(inpc,ipoinpc,iline,
     &         "*CONTACT PAIR, TYPE=STICKSLIP: a parameter%",ier)
          return
        endif
      enddo
      interaction=0
      do i=1,nmat
        if(matname(i).eq.material) interaction=i
      enddo
      if(interaction.eq.0) then
        write(*,*) '*ERROR reading *CONTACT PAIR, TYPE=STICKSLIP:'
        write(*,*) '       INTERACTION= names no *SURFACE INTERACTION'
        ier=1
        return
      endif
!
      do
        call getnewline(inpc,textpart,istat,n,key,iline,ipol,inl,
     &       ipoinp,inp,ipoinpc)
        if((istat.lt.0).or.(key.eq.1)) exit
        ntie=ntie+1
        if((ntie.gt.ntie_).or.(n.lt.2)) then
          call inputerror(inpc,ipoinpc,iline,
     &         "*CONTACT PAIR, TYPE=STICKSLIP: two surfaces%",ier)
          return
        endif
        tieset(1,ntie)=' '
        tieset(1,ntie)(81:81)='K'
        do side=2,3
          tieset(side,ntie)=textpart(side-1)(1:80)
          tieset(side,ntie)(len_trim(tieset(side,ntie))+1:)='T'
        enddo
        tietol(1,ntie)=sliding
        tietol(2,ntie)=interaction+0.5d0
        tietol(3,ntie)=modulus
        tietol(4,ntie)=0.d0
      enddo
      if(ntie.eq.first) then
        write(*,*) '*ERROR reading *CONTACT PAIR, TYPE=STICKSLIP:'
        write(*,*) '       no line with two surfaces follows'
        ier=1
        return
      endif
!
!     static steps go to nonlingeo; strains stay linear without NLGEOM
!
      if(iperturb(1).eq.0) iperturb(1)=2
      return
      end
